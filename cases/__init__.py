"""The case library: walls with what is known of them, one folder each, and the generators of some of them."""
