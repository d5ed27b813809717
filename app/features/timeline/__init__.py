"""The performance: requests and what plays."""
