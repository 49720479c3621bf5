"""What is measured of trials: one module for each group of tables."""
