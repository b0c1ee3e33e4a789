"""Search for a lower bound in floating point, and for the certificate that shows it in fractions."""
