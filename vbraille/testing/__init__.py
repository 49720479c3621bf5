"""What the tests of a driver or of a program on vbraille need: checks, devices, hands."""
