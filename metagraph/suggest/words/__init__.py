"""What the words in clip names mean. The words of each language are in `<language>.json`."""
