"""Parts planned by the workers of a Dask cluster."""
