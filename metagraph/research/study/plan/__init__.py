"""Planning a study: people, orders, sites, allocation and preregistration."""
