"""The little book by python-docx: styles of Word's own, no direct formatting."""

import sys

from docx import Document
from docx.enum.text import WD_BREAK
from docx.opc.constants import RELATIONSHIP_TYPE
from docx.oxml import OxmlElement
from docx.oxml.ns import qn


def element(tag, **attributes):
    made = OxmlElement(tag)
    for name, value in attributes.items():
        made.set(qn(name.replace("_", ":")), value)
    return made


def link(paragraph, text, **attributes):
    linked, run, words = element("w:hyperlink", **attributes), element("w:r"), element("w:t")
    words.text = text
    run.append(words)
    linked.append(run)
    paragraph._p.append(linked)


book = Document()
book.core_properties.title = "The Harbour"
first = book.add_heading("The Harbour", 1)._p
first.insert(1, element("w:bookmarkStart", w_id="1", w_name="harbour"))
first.append(element("w:bookmarkEnd", w_id="1"))
paragraph = book.add_paragraph("The boats come in with the ")
paragraph.add_run("evening").italic = True
paragraph.add_run(" tide, and ")
paragraph.add_run("nobody").bold = True
paragraph.add_run(" counts them.")
book.add_heading("What is brought", 2)
book.add_paragraph("herring", style="List Number")
book.add_paragraph("nets", style="List Number")
book.add_paragraph("torn", style="List Bullet 2")
book.add_paragraph("mended", style="List Bullet 2")
book.add_paragraph("salt", style="List Number")
table = book.add_table(rows=0, cols=2)
for texts in (("Fish", "Price"), ("cod", "12"), ("herring", "3")):
    for cell, text in zip(table.add_row().cells, texts, strict=True):
        cell.text = text
table.rows[0]._tr.get_or_add_trPr().append(element("w:tblHeader", w_val="true"))
book.add_paragraph("Count nothing on a Friday.", style="Quote")
run = book.add_paragraph().add_run("Les bateaux rentrent le soir.")
run._r.get_or_add_rPr().append(element("w:lang", w_val="fr-FR"))
run.add_break(WD_BREAK.PAGE)
book.add_heading("The light", 2)
book.add_picture("light.png")._inline.docPr.set("descr", "A lighthouse on a rock")
paragraph = book.add_paragraph("See ")
link(paragraph, "the harbour", w_anchor="harbour")
paragraph.add_run(" and ")
address = book.part.relate_to(
    "https://example.org/office", RELATIONSHIP_TYPE.HYPERLINK, is_external=True
)
link(paragraph, "the office", r_id=address)
paragraph.add_run(".")
paragraph = book.add_paragraph("Water is H")
paragraph.add_run("2").font.subscript = True
paragraph.add_run("O.")
book.save(sys.argv[1])
