"""From a plan to poses: layers, weight, contacts and feet."""
