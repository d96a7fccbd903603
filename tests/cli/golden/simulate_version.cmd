flightwatt-simulate --version && flightwatt simulate --version
