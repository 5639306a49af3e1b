"""Work for the window, off its thread: controller, columns at work, workers, errands."""
