flightwatt parse --outptu x something
