"""From a DXF file to the closed contours of a drawing, with a ledger of every entity: the only importer of ezdxf."""
