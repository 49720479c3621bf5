"""Print the table of speeds of docs/measured.md, or the parts of it that are named."""

import sys
from importlib import import_module

PARTS = (
    "render",
    "text",
    "engine",
    "tick",
    "sessions",
    "analysis",
    "coverage",
    "reader",
    "reading",
    "straying",
    "scene",
    "live",
    "screen",
)

if unknown := set(sys.argv[1:]) - set(PARTS):
    sys.exit(f"there is no benchmark {', '.join(sorted(unknown))}; there is {', '.join(PARTS)}")
print("| what | bar | got |\n|---|---|---|")
for part in sys.argv[1:] or PARTS:
    for result in import_module(f"tests.benchmarks.bench_{part}").run():
        print(result.row(), flush=True)
