"""Our own clips: a talking character, made by the code in `make`."""
