"""Read FBX motion files with the optional ufbx library, in separate processes."""
