//! The command line: arguments as typed, resolved, carried out; streams and exit codes.
