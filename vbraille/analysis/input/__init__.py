"""What is analysed: sessions and tables of trials, read and checked."""
