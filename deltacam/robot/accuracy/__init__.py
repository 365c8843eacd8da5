"""How exactly the tool is where it should be: errors of joints and lengths, and what they do over the sheet."""
