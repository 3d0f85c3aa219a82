// The page in a browser: the token comes in the fragment of its address, which no server sees.
window.startLive(document.body, window.location.hash.slice(1));
