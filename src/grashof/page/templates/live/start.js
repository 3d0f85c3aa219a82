// The page in a browser: the token comes in the fragment of its address, which no server sees, and so does a link.
(() => {
  const isLink = (part) => /^design(=|%3D)/i.test(part); // as in `design_link.py`
  const parts = () => window.location.hash.slice(1).split("&");
  const token = parts().find((part) => !isLink(part)) || "";
  // The link in the address, which then has the token alone again.
  const link = () => {
    const found = parts().find(isLink);
    if (found) window.history.replaceState(null, "", `#${token}`);
    return found ? `#${found}` : "";
  };
  const live = window.startLive(document.body, token, link());
  window.addEventListener("hashchange", () => {
    const wanted = link();
    if (wanted) live.open({ link: wanted });
  });
})();
