flightwatt synthesize --help
