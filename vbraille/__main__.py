"""``python -m vbraille``."""

from vbraille.cli import main

raise SystemExit(main())
