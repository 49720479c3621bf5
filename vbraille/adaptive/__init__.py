"""Questions chosen by the answers: staircases, QUEST+, and estimates on a grid."""
