"""Why a file of a display could not be opened."""

import errno
import os
import shutil

import pytest

from vbraille.conventional.opening import not_opened


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a file to a group")
@pytest.mark.parametrize(
    ("group", "helps"),
    [
        (
            "dialout",
            "add yourself to the group dialout (sudo usermod -aG dialout $USER) and log in again",
        ),
        ("root", "give it a group of yours by a udev rule, as docs/conventional.md says"),
    ],
)
def test_who_may_not_is_told_the_group(tmp_path, group, helps):
    file = tmp_path / "port"
    file.touch()
    shutil.chown(file, group=group)
    said = str(not_opened(PermissionError(errno.EACCES, ""), str(file), "serial port"))
    assert said == f"you may not open {file}; {helps}"
