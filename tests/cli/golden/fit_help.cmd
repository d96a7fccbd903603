flightwatt fit --help
