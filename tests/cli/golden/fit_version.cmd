flightwatt-fit --version && flightwatt fit --version
