"""The pages: report, appendix, study, difference and teaching, with the data and files beside them."""
