"""OpenLatero's files, scenes (``.gen``) and textures (``.tx``), read leniently as our scenes.

OpenLatero is the open software of the author of the thesis, and its files are the content that
there is. What a file says is told with its line wherever it differs from what is shown here.
"""

from vbraille.scene.openlatero.reading import read_gen as read_gen
