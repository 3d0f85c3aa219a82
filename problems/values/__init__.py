"""Problems and linkages as values."""
