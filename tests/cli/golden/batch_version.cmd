flightwatt-batch --version && flightwatt batch --version
