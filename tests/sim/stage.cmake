# tests of the simulated stage
