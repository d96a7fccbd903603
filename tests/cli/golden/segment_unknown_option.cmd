flightwatt segment --outptu x something
