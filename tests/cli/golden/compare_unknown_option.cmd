flightwatt compare --outptu x something
