"""``python -m vbraille``."""

from vbraille.cli.main import main

raise SystemExit(main())
