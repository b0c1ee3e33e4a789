"""Check of certificates in fractions: the standard library alone, and nothing of what found them."""
