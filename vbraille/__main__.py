"""``python -m vbraille``."""

from vbraille.cli.app import main

raise SystemExit(main())
