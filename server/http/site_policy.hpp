// Which pages in a browser may make it call this server.
//
// A browser sends requests for whatever page it shows, to localhost too. Two things are looked at:
// under which name the server was reached, for a page of a name that the page's owner pointed at
// this machine (DNS rebinding) has its own name in Host; and whose page asks for a change (Origin,
// Sec-Fetch-Site). Programs that are no browsers send neither of the last two and are not affected.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace symcell::server {

class SitePolicy {
 public:
  // `bound`: the address listened on. `hosts`: names to be reached under besides the loopback ones,
  // that address and, where all addresses are listened on, any address by its number and this
  // machine's name; "*": any. `origins`: whose pages may call and read answers; "*": all.
  SitePolicy(std::string bound, std::vector<std::string> hosts, std::vector<std::string> origins);

  // `host`: the field Host, in any case, with or without a port.
  [[nodiscard]] bool allows_host(std::string_view host) const;
  // Whether a request that changes something may come from there. Empty: the field is missing.
  [[nodiscard]] bool allows_change(std::string_view host,
                                   std::string_view origin,
                                   std::string_view fetch_site) const;
  // What Access-Control-Allow-Origin is to say to this origin; empty: nothing.
  [[nodiscard]] std::string shared_with(std::string_view origin) const;
  // It says different things to different origins.
  [[nodiscard]] bool varies_by_origin() const { return !origins_.empty(); }

 private:
  std::string bound_;
  std::string machine_;  // its name; empty: not listened on all addresses
  bool bound_to_all_;
  std::vector<std::string> hosts_;
  std::vector<std::string> origins_;
};

}  // namespace symcell::server
