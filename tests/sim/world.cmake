# tests of the simulated world
