"""Report descriptors of braille displays, after the sample in HUTRR78 and what makers made."""

KEYBOARD = "1a0102 2a0802 1500 2501 7501 9508 8102"  # dots 1 to 8, a bit each

# As the standard has it, its slip too: the cells of the row are called a row (09 02), and are
# constant (91 03). Reports have no numbers. Input is 6 bytes: dots; two spaces, the joystick and
# a bit of nothing; left and right buttons; face buttons; 20 routing keys.
STANDARD = bytes.fromhex(
    f"0541 0901 a101 {KEYBOARD}"
    "0541 0a0a02 0a0b02 0a1002 0a1102 0a1202 0a1302 0a1402 7501 9507 8102 7501 9501 8103"
    "0a0d02 a102 0509 1901 2903 7501 9503 8102 c0"
    "0541 0a0e02 a102 0509 1901 2903 7501 9503 8102 c0 7502 9501 8103"
    "0541 0a0c02 a102 0509 1901 2904 7501 9504 8102 7504 9501 8103 c0"
    "0541 0902 a102 0902 1500 26ff00 7508 9514 9103"
    "09fa a102 0a0001 1500 2501 7501 9514 8102 7504 9501 8103 c0 c0 c0"
)

# Reports with numbers: keys and panning keys are 1, routing keys 2, forty cells 3. Beside it is
# a keyboard of letters, as some displays have one.
NUMBERED = bytes.fromhex(
    "0501 0906 a101 8509 0507 19e0 29e7 1500 2501 7501 9508 8102 c0"
    f"0541 0901 a101 8501 {KEYBOARD}"
    "0a1a02 0a1b02 0a1c02 0a1d02 9504 8102 9504 8101"
    "8502 09fa a102 0a0001 1500 2501 7501 9528 8102 c0"
    "8503 0902 a102 0903 26ff00 7508 9528 9102 c0 c0"
)

# Two rows of three cells of eight dots, a report each, with a set of routing keys in each row, and
# a row of two cells of six dots that is for a status. Usages have their page with them.
ROWS = bytes.fromhex(
    "0541 0901 a101"
    "8501 0b02004100 a102 0b03004100 1500 26ff00 7508 9503 9102"
    "09fa a102 0a0001 2501 7501 9503 8102 9505 8103 c0 c0"
    "8502 0902 a102 0903 26ff00 7508 9503 9102"
    "09fa a102 0a0001 2501 7501 9503 8102 9505 8103 c0 c0"
    "8503 0902 a102 0904 253f 7508 9502 9102 c0 c0"
)

# One row of four cells of six dots in 6 bits each, in two fields, after a byte of something else;
# of sixteen routing keys it tells by the number of the one that is down.
PACKED = bytes.fromhex(
    "0541 0901 a101 0906 7508 9501 26ff00 9102"
    "0902 a102 0904 1500 253f 7506 9503 9102 0904 9501 9102 c0"
    "09fa a102 0a0001 1501 2510 7508 9501 8100 c0 c0"
)

MOUSE = bytes.fromhex(
    "0501 0902 a101 0901 a100 0509 1901 2903 1500 2501 9503 7501 8102 9501 7505 8103"
    "0501 0930 0931 1581 257f 7508 9502 8106 c0 c0"
)
