"""A study's data as other tools read it: BIDS and XES."""
