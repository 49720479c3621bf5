"""Results as a report: a page, a text, their numbers and their figures.

`write_report` makes a directory of them. The texts are made without a drawing:
only `write_report` imports matplotlib, when it is called.
"""

from vbraille.analysis.report.tohtml import to_html
from vbraille.analysis.report.tojson import to_json
from vbraille.analysis.report.tomarkdown import to_markdown
from vbraille.analysis.report.written import write_report

__all__ = ["to_html", "to_json", "to_markdown", "write_report"]
