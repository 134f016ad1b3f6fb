//! Assets that are small and ask for much.
