"""What the whole domain uses: files, programs, text formats, limits on reading, translatable words."""
