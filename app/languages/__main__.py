"""`python -m app.languages` brings the catalogues up to date."""

import sys

from app.languages.catalogues import main

sys.exit(main(sys.argv[1:]))
