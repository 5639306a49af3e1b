"""What the docks show of subbands: mosaics, one band large, distributions."""
