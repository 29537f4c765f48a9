"""Reads the head of .vtp files as readers of VTK do: blocks of 4096 bytes up to the tag AppendedData, what
of the tag stands in its block, the rest of it byte by byte, and an end made up. Fails where expat has not
told of the tag then: the reader would take the data for XML (https://gitlab.kitware.com/vtk/vtk/-/issues/19258).
   find_appended_data.py FILE...      the last line says how many of the same files would fail without white space"""
import re
import sys
import xml.parsers.expat


def tag_is_told(content):
    told = []
    parser = xml.parsers.expat.ParserCreate()
    parser.StartElementHandler = lambda name, _: told.append(name)
    feed = lambda piece: parser.Parse(piece, False) if piece else None
    behind = content.index(b"<AppendedData") + len(b"<AppendedData")
    block = (behind - 1) // 4096 * 4096
    for k in range(0, block, 4096):
        feed(content[k : k + 4096])
    feed(content[block:behind])
    close = content.index(b">", behind)
    block_ends = min(block + 4096, len(content))
    feed(content[behind : min(close, block_ends)])
    for k in range(block_ends, close):
        feed(content[k : k + 1])
    feed(b"/")
    feed(b">")
    feed(b"\n</VTKFile>\n")
    return "AppendedData" in told


wrong = without = 0
for name in sys.argv[1:]:
    content = open(name, "rb").read()
    wrong += not tag_is_told(content)
    without += not tag_is_told(re.sub(rb' *<AppendedData encoding="raw" *>', b'<AppendedData encoding="raw">', content, 1))
print(without)
sys.exit(wrong or len(sys.argv) < 2)
