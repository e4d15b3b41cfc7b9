// Hands in the token that stands behind the # of the address, and takes it out of the address.
// A place in the page, such as t=1.5, is no token.
const token = location.hash.includes("=") ? "" : location.hash.slice(1);
const role = location.pathname.split("/")[1];
if (token) {
  history.replaceState(null, "", location.pathname + location.search);
  fetch(`/enter/${role}`, { method: "POST", body: token }).then((answer) => {
    const said = { 401: "This token is wrong, or of an earlier session.", 429: "Too many wrong tokens: wait a minute." };
    if (answer.ok) location.reload();
    else document.getElementById("message").textContent = said[answer.status] ?? `Refused (${answer.status}).`;
  });
}
