"""The error of a question that the scores cannot answer."""


class Unanswerable(ValueError):  # noqa: N818 - what is wrong is the question
    """Error of a question that has no answer for these scores.

    The message is a short clause with the reason, fit to stand in a report in
    place of the number: "one participant; a t-test needs two".
    """
