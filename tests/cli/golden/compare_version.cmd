flightwatt-compare --version && flightwatt compare --version
