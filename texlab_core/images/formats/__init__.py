"""Files of images and of maps: reading, writing, what they carry beside pixels."""
