"""Problems of the project, and their remedies."""
