"""Questions chosen by the answers: QUEST+, and estimates on a grid."""
