# tests of the simulated camera
