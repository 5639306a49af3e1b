"""A soak of the window: thousands of random real events, and what they leave behind."""
