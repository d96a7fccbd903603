flightwatt --version
