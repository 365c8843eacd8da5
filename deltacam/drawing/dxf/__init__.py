"""The bytes of a file to an ezdxf document, with what was lost on the way."""
