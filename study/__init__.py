"""The experiment: which triangulations, where they run, what is kept, what is tested."""
