"""Build the window around the features: docks, menus, header, status bar. It knows no feature by name."""
