"""An ezdxf document to entities with curves in the sheet plane."""
