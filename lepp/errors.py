"""What callers can get wrong."""


class InputError(ValueError):
    """An input that cannot be used; the message says what is wrong and what to do."""
