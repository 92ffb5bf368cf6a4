# target_sources(fvd_sim PRIVATE ...) of the simulated camera
