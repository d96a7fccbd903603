flightwatt-segment --version && flightwatt segment --version
