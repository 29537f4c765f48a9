// What a Visitor must answer, as members of a class that derives from it: the one list for the
// Reader and the Describer.
bool quantity(const Key&, double&, const char* unit, Range, const char*) override;
bool integer(const Key&, int&, Range, const char*) override;
bool flag(const Key&, bool&, const char*) override;
bool text(const Key&, std::string&, const char*) override;
bool texts(const Key&, std::vector<std::string>&, const char*) override;
bool quantities(const Key&, std::vector<double>&, const char* unit, Range, int count, const char*,
                const char* per) override;
bool one_or_each(const Key&, double&, std::vector<double>&, const char* unit, Range,
                 const char*) override;
bool matrix(const Key&, Matrix<6>&, const char* translation, const char* coupling,
            const char* rotation, const char*) override;
bool option(const Key&, int& index, std::span<const Option>, const char*) override;
bool options(const Key&, std::vector<std::string>&, std::span<const Option>, const char*) override;
bool name(model::Entity&, const char* kind) override;
bool location(const Key&, model::Location&, const char*) override;
bool material(const Key&, std::size_t&, const char*) override;
bool shaft(const Key&, std::size_t&, const char*) override;
bool step(const Key&, std::string&, const char*) override;
void free_table(const Key&, const char*) override;
bool table(const Key&, const std::function<void(Visitor&)>&, const char*) override;
void list(const Key&, const ListBody&, const char*) override;
bool rows(const ListBody&, bool must, const char*) override;
void alternatives(const Key&, std::span<const Alternative>, const char*) override;
bool either(const Key&, double&, const char* unit, bool& is_simple,
            const std::function<void(Visitor&)>&, const char*) override;
bool clean() const override;
bool given(const char* key) const override;
void error(const char* code, const char* key, std::string message, std::string hint) override;
void warning(const char* code, const char* key, std::string message, std::string hint) override;
Where where() const override;
const model::Model& model() const override;
