"""Which clip enters and leaves which stance without a jump, as a table."""
