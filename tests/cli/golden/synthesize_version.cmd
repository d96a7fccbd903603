flightwatt-synthesize --version && flightwatt synthesize --version
