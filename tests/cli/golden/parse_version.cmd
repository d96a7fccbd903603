flightwatt-parse --version && flightwatt parse --version
