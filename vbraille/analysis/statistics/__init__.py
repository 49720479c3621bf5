"""Statistics of plain numbers: intervals, tests, scales, information.

`intervals`
    Intervals of proportions, means, shares and correlations; corrections of p; the error of a
    question that the scores cannot answer.
`comparisons`, `anova`
    Means, effects and differences in the cells of a design.
`bradleyterry`
    Scales and preferred values of paired comparisons.
`trialsmodel`
    Logistic models of single trials, with participants as clusters, of many studies at once; and
    the shares and tests that come from them.
`psychometric`, `detection`
    Thresholds of a reader, d′ and criterion.
`information`
    How much of what was presented came through, from a table of answers.
"""
