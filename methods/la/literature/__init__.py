"""Methods of the literature: the programme of Baggio and Trovalusci, Gilbert's sequence, finite elements first."""
