"""The live page: a task edited by hand in the browser, and the verified list that follows."""
