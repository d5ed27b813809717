"""The window round the features: docks, menus, header, status. It knows no feature by name."""
