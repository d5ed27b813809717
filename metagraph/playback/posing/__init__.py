"""Turn plans into poses: layers, weight, contacts and feet."""
