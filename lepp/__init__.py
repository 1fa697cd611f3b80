"""The mathematics: triangulations and their longest-edge propagation paths."""
