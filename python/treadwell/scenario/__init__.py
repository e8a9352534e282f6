"""The scenario file: its tables, how it is read, overridden, drawn and complained about."""
