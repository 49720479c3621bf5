"""Programs of ours as forks of a process that has loaded all of them, instead of new Pythons.

Loading what drives actuators takes most of the time that a test with a process takes, and is alike
in each. So `subprocess` is told here to hand ``python -m vbraille…`` to a *nursery*: a process that
each process which starts programs has, and which loads once and forks itself for each program. A
child has the arguments, environment, folder, limits, signals, session and open files that a new
program would have, and is a child of the process that asked for it: the fork between them ends at
once, and the system gives orphans to the nearest process that says it takes them.

Tests marked ``new_processes`` have new Pythons: those of how a program begins and ends. So has
whatever asks for something that a fork would not have.
"""

from __future__ import annotations

import atexit
import ctypes
import fcntl
import gc
import inspect
import json
import os
import resource
import runpy
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
import traceback
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages
from typing import Any, NoReturn

# Rooms of statistics and drawing would make each fork slower; what needs them loads them itself.
_LOADED_LATER = ("vbraille.analysis", "vbraille.pictures", "vbraille.testing")
# What Python, its compiler and its libraries take from the environment when they begin.
_FROM_THE_BEGINNING = ("PYTHON", "LD_", "LC_", "LANG", "NUMBA_")
_SUBREAPER, _NAME = 36, 15  # of prctl
_LIMITS = sorted(number for name, number in vars(resource).items() if name.startswith("RLIMIT_"))
_LENGTH = struct.Struct("<I")
_MOST_DESCRIPTORS = 64
_OUT_OF_THE_WAY = 500  # from here on are descriptors that no program is given
# A program that leads its session, and whose first terminal is the session's: Ctrl-C works.
_AT_TERMINAL = 'exec "$@" <>"$0" >&0 2>&0'

_libc = ctypes.CDLL(None)
_really_execute = subprocess.Popen._execute_child
_parameters = inspect.signature(_really_execute)


class Nursery:
    """A process that forks programs; it begins when the first fork is wanted.

    Parameters
    ----------
    line
        Line to the process, where there is one.

    Attributes
    ----------
    used : bool
        Whether programs are forks for now.
    """

    def __init__(self, line: socket.socket | None = None) -> None:
        self.used = True
        self._begun_as = _surroundings(dict(os.environ))
        self._begun = line is not None
        if line is None:
            # Both ends stay: a test may count descriptors before and after the first use.
            line, self._end = socket.socketpair()
        self._line = line

    def takes(self, asked: dict[str, Any]) -> bool:
        """Tell whether a fork would be what `subprocess` is asked for."""
        command, folder = asked["args"], asked["cwd"]
        return (
            self.used
            and isinstance(command, list)
            and command[:2] == [sys.executable, "-m"]
            and str(command[2]).partition(".")[0] == "vbraille"
            and asked["executable"] in (None, sys.executable)
            and asked["preexec_fn"] is None
            and asked["close_fds"]
            and all(number < _OUT_OF_THE_WAY for number in asked["pass_fds"])
            and (folder is None or Path(os.fsdecode(folder)).is_dir())
            and not asked["shell"]
            and all(asked[name] is None for name in ("gid", "gids", "uid"))
            and asked["process_group"] == -1
            # The system ends a child with the thread that began it; an orphan's is the first.
            and threading.current_thread() is threading.main_thread()
            and _surroundings(asked["env"]) == self._begun_as
        )

    def fork(self, asked: dict[str, Any], terminal: str | None) -> int:
        """Begin a process; its number."""
        wanted = {number: number for number in asked["pass_fds"]}
        for number, name in enumerate(("p2cread", "c2pwrite", "errwrite")):
            given = number if asked[name] == -1 else asked[name]
            with suppress(OSError):  # closed, here and there
                os.fstat(given)
                wanted[number] = given
        blocked = signal.pthread_sigmask(signal.SIG_BLOCK, ())
        order = {
            "arguments": [os.fsdecode(word) for word in asked["args"][2:]],
            "environment": asked["env"],
            "folder": os.fsdecode(asked["cwd"] or Path.cwd()),
            "umask": _umask() if asked["umask"] == -1 else asked["umask"],
            "descriptors": list(wanted),
            "ignored": [n for n in signal.valid_signals() if signal.getsignal(n) is signal.SIG_IGN],
            "blocked": list(blocked),
            "limits": [resource.getrlimit(limit) for limit in _LIMITS],
            "leads": bool(asked["start_new_session"]),
            "terminal": terminal,
            "parent": os.getpid(),
        }
        if not self._begun:
            self._begin()
        told = json.dumps(order).encode()
        # Nothing that the handler of a signal raises comes between an order and its answer.
        signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())
        _libc.prctl(_SUBREAPER, 1)
        try:
            socket.send_fds(self._line, [_LENGTH.pack(len(told))], [*wanted.values()])
            self._line.sendall(told)
            (number,) = _LENGTH.unpack(_whole(self._line, _LENGTH.size))
        finally:
            _libc.prctl(_SUBREAPER, 0)
            signal.pthread_sigmask(signal.SIG_SETMASK, blocked)
        return number

    def _begin(self) -> None:
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        end = self._end.fileno()
        self.used, self._begun = False, True
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.forking", str(end)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            pass_fds=[end],
            env={**environment, "OPENBLAS_NUM_THREADS": "1"},  # a second thread is not forked
            cwd=Path(__file__).parent.parent,
        )
        self.used = True


class AtTerminal(subprocess.Popen):
    """A program that leads a session; its terminal has a path."""

    def __init__(self, terminal: str, command: list[str], **options: Any) -> None:
        self.terminal = terminal
        shell = ["sh", "-c", _AT_TERMINAL, terminal, *command]
        super().__init__(shell, start_new_session=True, **options)


def begin() -> None:
    """From now on start programs of ours by forks."""
    global nursery
    nursery = Nursery()
    subprocess.Popen._execute_child = _execute


def children(number: int) -> list[int]:
    """Numbers of the processes that a process has begun, the eldest first."""
    found = Path(f"/proc/{number}/task/{number}/children").read_text().split()
    return [int(child) for child in found if Path(f"/proc/{child}/comm").read_text() != "nursery\n"]


def _execute(process: subprocess.Popen, *given: Any, **named: Any) -> None:
    """Start a program, as `subprocess.Popen` asks for it."""
    asked = _parameters.bind(process, *given, **named).arguments
    terminal = getattr(process, "terminal", None)
    if terminal is not None:
        asked["args"] = asked["args"][4:]
    asked["env"] = dict(os.environ if asked["env"] is None else asked["env"])
    if not nursery.takes(asked):
        _really_execute(process, *given, **named)
        return
    sys.audit("subprocess.Popen", sys.executable, asked["args"], asked["cwd"], asked["env"])
    process.pid = nursery.fork(asked, terminal)
    process._child_created = True
    ends = ("p2cread", "p2cwrite", "c2pread", "c2pwrite", "errread", "errwrite")
    process._close_pipe_fds(*(asked[name] for name in ends))


def _surroundings(environment: dict[str, str]) -> tuple[Any, ...]:
    """Environment, users and processors that a fork inherits from the process that forks it."""
    told = {
        name: value
        for name, value in environment.items()
        if name.startswith(_FROM_THE_BEGINNING) and name != "PYTHONPATH"
    }
    return told, os.getresuid(), os.getresgid(), os.sched_getaffinity(0)


def _umask() -> int:
    with Path("/proc/self/status").open() as status:
        return next(int(line.split()[1], 8) for line in status if line.startswith("Umask"))


def _whole(line: socket.socket, size: int) -> bytes:
    """So many bytes.

    Raises
    ------
    EOFError
        If the line ends before.
    """
    read = b""
    while len(read) < size:
        part = line.recv(size - len(read))
        if not part:
            raise EOFError("the nursery has ended")
        read += part
    return read


# What follows runs in the process of a nursery, and in its forks.


def _serve(line: socket.socket) -> NoReturn:
    """Fork for each order, until there are no more."""
    while True:
        length, descriptors, _, _ = socket.recv_fds(line, _LENGTH.size, _MOST_DESCRIPTORS)
        if not length:
            os._exit(0)
        order = json.loads(_whole(line, *_LENGTH.unpack(length)))
        number = _fork_orphan(order, descriptors)
        for descriptor in descriptors:
            os.close(descriptor)
        line.sendall(_LENGTH.pack(number))


def _fork_orphan(order: dict[str, Any], descriptors: list[int]) -> int:
    """Fork a process whose parent ends at once, so that it gets the one who asked for it."""
    reading, writing = os.pipe()
    between = os.fork()
    if between == 0:
        child = os.fork()
        if child == 0:
            try:
                _be(order, descriptors)
            except BaseException:
                traceback.print_exc()
            os._exit(1)
        os.write(writing, _LENGTH.pack(child))
        os._exit(0)
    os.close(writing)
    (number,) = _LENGTH.unpack(os.read(reading, _LENGTH.size))
    os.close(reading)
    os.waitpid(between, 0)
    return number


def _be(order: dict[str, Any], descriptors: list[int]) -> NoReturn:
    """Be the program that was asked for."""
    global nursery
    while os.getppid() != order["parent"]:
        time.sleep(0.0002)
    _libc.prctl(_NAME, b"python")
    if order["leads"]:
        os.setsid()
    wanted = dict(zip(order["descriptors"], descriptors, strict=True))
    if order["arguments"][0] == "vbraille":
        nursery = Nursery(_fork_nursery(wanted))
    else:  # a process of its own, such as a host, begins no others
        _keep_descriptors(wanted)
        nursery.used = False
    if order["terminal"] is not None:
        for number in range(3):
            with suppress(OSError):
                os.close(number)
        os.open(order["terminal"], os.O_RDWR)
        os.dup2(0, 1)
        os.dup2(0, 2)
    _open_streams()
    os.chdir(order["folder"])
    os.umask(order["umask"])
    os.environ.clear()
    os.environ.update(order["environment"])
    time.tzset()
    paths = order["environment"].get("PYTHONPATH", "").split(os.pathsep)
    sys.path[:1] = [str(Path.cwd()), *(str(Path(path).absolute()) for path in paths if path)]
    for limit, values in zip(_LIMITS, order["limits"], strict=True):
        if resource.getrlimit(limit) != tuple(values):
            resource.setrlimit(limit, values)
    gc.enable()
    _reset_signals(order["ignored"])
    signal.pthread_sigmask(signal.SIG_SETMASK, order["blocked"])
    _run(*order["arguments"])


def _fork_nursery(wanted: dict[int, int]) -> socket.socket:
    """Fork a nursery of this process's own, as fresh as it is itself; the line to it.

    Parameters
    ----------
    wanted
        Descriptors that this process has besides from now on: their numbers, and copies of them.
    """
    line, end = map(_move, socket.socketpair())
    if os.fork() != 0:
        _keep_descriptors(wanted, line)
        return line
    _libc.prctl(_NAME, b"nursery")
    for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP, signal.SIGCHLD}:
        if signal.getsignal(number) is not None:
            signal.signal(number, signal.SIG_IGN)
    _keep_descriptors(dict.fromkeys(range(3), os.open(os.devnull, os.O_RDWR)), end)
    _serve(end)


def _move(own: socket.socket) -> socket.socket:
    """Have a line be out of the way of descriptors that are wanted."""
    return socket.socket(fileno=fcntl.fcntl(own.detach(), fcntl.F_DUPFD_CLOEXEC, _OUT_OF_THE_WAY))


def _keep_descriptors(wanted: dict[int, int], *lines: socket.socket) -> None:
    """Have the descriptors of some numbers be copies of others, and no more but our own lines."""
    held = {
        number: fcntl.fcntl(given, fcntl.F_DUPFD, _OUT_OF_THE_WAY)
        for number, given in wanted.items()
    }
    kept = {*held.values(), *(line.fileno() for line in lines)}
    for name in os.listdir("/proc/self/fd"):  # noqa: PTH208 - numbers
        if int(name) not in kept:
            with suppress(OSError):
                os.close(int(name))
    for number, given in held.items():
        os.dup2(given, number)
        os.close(given)


def _open_streams() -> None:
    """Open the standard streams as Python does when it begins."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        stream = None
        with suppress(OSError):  # it is closed
            stream = open(  # noqa: SIM115
                number,
                "w" if number else "r",
                buffering=1 if number == 2 else -1,
                encoding="utf-8",
                errors="backslashreplace" if number == 2 else "surrogateescape",
                newline="\n",
                closefd=False,
            )
        setattr(sys, name, stream)
        setattr(sys, f"__{name}__", stream)


def _reset_signals(ignored: list[int]) -> None:
    """Have the handlers that a new Python has; those that are not Python's own stay."""
    ignored = [*ignored, signal.SIGPIPE, signal.SIGXFSZ]
    for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
        if signal.getsignal(number) is not None:
            signal.signal(number, signal.SIG_IGN if number in ignored else signal.SIG_DFL)
    if signal.SIGINT not in ignored:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _run(module: str, *arguments: str) -> NoReturn:
    """Run a module as ``python -m`` does, and end as Python ends."""
    sys.argv = [module, *arguments]
    if module != "vbraille":
        sys.modules.pop(module, None)
    code: Any = 0
    try:
        runpy.run_module(module, run_name="__main__", alter_sys=True)
    except SystemExit as end:
        code = end.code
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        code = -signal.SIGINT
        sys.excepthook(*sys.exc_info())
    except BaseException:
        sys.excepthook(*sys.exc_info())
        code = 1
    if code is not None and not isinstance(code, int):
        print(code, file=sys.stderr)
        code = 1
    threading._shutdown()
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        try:
            if stream is not None:
                stream.flush()
        except (OSError, ValueError):
            code = 120
    if code == -signal.SIGINT:
        signal.raise_signal(signal.SIGINT)
    os._exit((code or 0) & 0xFF)


def _load() -> None:
    """Load all that a program may, and what is compiled of it."""
    import vbraille

    for found in walk_packages(vbraille.__path__, "vbraille."):
        if not found.name.startswith(_LOADED_LATER) and not found.name.endswith("__main__"):
            import_module(found.name)
    from vbraille.engine import hostprocess

    display = hostprocess._ANY
    hostprocess.warm_up(display)


def _main() -> NoReturn:
    _reset_signals([*signal.valid_signals()])
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    gc.disable()
    _load()
    gc.collect()
    gc.freeze()
    import tests.forking as module  # in which a fork, whose main module is another, finds itself

    module.begin()
    module._serve(socket.socket(fileno=int(sys.argv[1])))


if __name__ == "__main__":
    _main()
