"""The command line of deltacam: parses, calls the library, shows. No maths."""
