"""Labels: words, numbers and facts as a reader meets them."""
