"""What is worked out of legibility sessions: intervals, tests, scales, information.

`unanswerable`
    The error of a question that the scores cannot answer.
`intervals`, `paired`, `correction`, `anova`
    Proportions and means with their intervals; tests between conditions.
`bradleyterry`
    Scales and preferred values of paired comparisons.
`trialsmodel`, `marginalmeans`
    Logistic models of single trials, with participants as clusters, of many studies at once.
`mixedanova`
    Factors between participants beside those within.
`psychometric`, `detection`, `ratings`
    Thresholds of a reader, d′ and criterion, ratings on a scale.
`information`
    How much of what was presented came through, from a table of answers.

Nothing is re-exported here: scipy.stats takes half a second to import, and
`information` needs numpy only.
"""
