"""Writing a performance as video, contact sheet or motion."""
