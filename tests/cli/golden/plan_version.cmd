flightwatt-plan --version && flightwatt plan --version
