"""Results as a report: a page, a text, their numbers and their figures."""
