"""FBX motion files, read by the optional ufbx library in processes of their own."""
