"""The checks: small functions of one purpose each, in one table."""
