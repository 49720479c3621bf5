"""The live view: a page in a browser that shows the text, the array and the skin, and steers."""
