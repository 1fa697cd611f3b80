"""The paper: its numbers, how they are judged beside ours, and what it states."""
