"""Measures of trials: one module for each group of tables."""
