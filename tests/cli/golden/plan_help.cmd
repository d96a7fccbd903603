flightwatt plan --help
