flightwatt plan --outptu x something
