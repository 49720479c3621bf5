"""Data that are analysed: sessions and tables of trials, read and checked."""
