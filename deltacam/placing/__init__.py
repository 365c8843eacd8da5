"""Where on the sheet, and how turned, a part is cut fastest and most accurately."""
