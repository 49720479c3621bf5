#!/bin/sh
# Make the books of other programs again: pandoc 2.17, LibreOffice 7.4, liblouisutdml 2.11.
# pythondocx.py needs python-docx 1.2; run it with a Python that has it.
set -e
cd "$(dirname "$0")"
# Other forms than HTML take no tags from Markdown.
sed 's|<sub>2</sub>|~2~|' harbour.md >made.md
pandoc -f markdown-smart -s -t epub2 made.md -o pandoc-2.epub
pandoc -f markdown-smart -s -t epub3 made.md -o pandoc-3.epub
for form in docx odt rtf html; do
    pandoc -f markdown-smart -s made.md -o pandoc.$form
done
soffice --headless --convert-to odt --outdir made pandoc.odt 2>/dev/null
soffice --headless --convert-to docx --outdir made pandoc.odt 2>/dev/null
soffice --headless --convert-to rtf --outdir made pandoc.odt 2>/dev/null
soffice --headless --convert-to html --outdir made pandoc.odt 2>/dev/null
soffice --headless --convert-to epub --outdir made pandoc.odt 2>/dev/null
for form in odt docx rtf html epub; do
    mv made/pandoc.$form libreoffice.$form
done
rm -r made made.md
python3 pythondocx.py pythondocx.docx
file2brl -CcellsPerLine=40 -ClinesPerPage=25 pandoc.html file2brl.brf
rm -f appended_html.sem file2brl.temp
brailleutils generate brailleutils.pef -volumes=1 -pages=2 -rows=5 -cols=20
