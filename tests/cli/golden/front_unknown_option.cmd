flightwatt --verbose
