"""The editor of De Bonet's threshold table: small in the parameter panel, large in a dock."""
