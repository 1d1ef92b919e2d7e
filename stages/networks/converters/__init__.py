"""One published weight file a file: what turns it into the weights of an architecture of ours."""
