"""The catalogues of the window's languages, one folder each; translators edit the `.po` files."""
