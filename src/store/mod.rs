//! Files: run records (HDF5), tables (CSV). One file per format, the only place that knows it.
